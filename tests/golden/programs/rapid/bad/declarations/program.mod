MODULE M
  VAR string s:="x";
  VAR num list{5};
  CONST num c;
  CONST num d:=c+1;
  VAR num n:=m;
  VAR num m;
  VAR bool m;
  VAR num k:=m;
  VAR num;
  VAR 5;
  VAR num x:=1,y:=2,x;
  PERS clock cl;
  PROC main()
    PERS num p:=1;
    VAR num y:=3;
    IF y=3 THEN
      VAR num z;
    ENDIF
    s:=1;
    list{1}:=2;
    n:=list{2};
    x{1}:=2;
    n:=x{1};
  ENDPROC
ENDMODULE
