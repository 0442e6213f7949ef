MODULE M
  VAR num n;
  PROC main()
    n:=;
    n:=1+;
    n:=(1+2;
    n:=1..2;
    n:=12ab;
    n:=1E999;
    n:="x";
    n:=[1,2];
    n:=CRobT();
    n:=Dist(a,b);
    n:=#;
    IF THEN
    ENDIF
    FOR FROM 1 TO 2 DO
    ENDFOR
    FOR i FROM 1 DO
    ENDFOR
  ENDPROC
ENDMODULE
