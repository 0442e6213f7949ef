MODULE M
  CONST num c:=1;
  VAR speeddata slow:=[1,1,1,1];
  CONST robtarget p1:=[[600,100,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PROC main()
    c:=2;
    p1:=p1;
    p1.trans.x:=1;
    slow:=slow;
    FOR i FROM 1 TO 2 DO
      i:=3;
    ENDFOR
    i:=4;
  ENDPROC
ENDMODULE
