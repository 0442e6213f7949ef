MODULE M
  CONST robtarget p1:=[[600,100,400],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  CONST jointtarget home:=[[0,-30,30,0,60,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  VAR num n;
  VAR bool b;
  VAR robtarget p2;
  CONST speeddata slow:=[10,10,10,10];
  PROC main()
    n:=TRUE;
    b:=1;
    p2:=home;
    n:=p1;
    MoveL home,v100,fine,tool0;
    MoveAbsJ p1,v100,fine,tool0;
    MoveL n,v100,fine,tool0;
    IF n THEN
    ENDIF
    WHILE p1 DO
    ENDWHILE
    n:=1+TRUE;
    b:=n AND b;
    b:=b<TRUE;
    b:=p1=p1;
    b:=NOT n;
    n:=-b;
    MoveL p1,n,fine,tool0;
    n:=slow;
    n:=Sin(b);
    n:=Sin(1,2);
    n:=Offs(p1,1,2,3);
    FOR i FROM TRUE TO 3 DO
    ENDFOR
    WaitTime b;
  ENDPROC
ENDMODULE
